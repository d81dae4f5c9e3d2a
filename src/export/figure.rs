//! Figures for print: curves of numbers in, one SVG text out.
//!
//! A [`Panel`] is one pair of axes with its [`Curve`]s and [`Guide`]s (the barrier, the zero line); [`figure`] sets
//! panels two abreast on a page 720 units wide (190 mm at 96 units per inch), with one legend for all of them above
//! and a caption below. [`impact_figure`] and [`motion_figure`] are panels ready made:
//!
//! - impact: (A) phase plane x, x'; (B) x(t); (C) the contact alone, penetration x - x_c against time since touch;
//! - motion: (A) x(t), formula over truth; (B) x_formula(t) - x_true(t); (C) phase plane.
//!
//! Nothing is read or written, and the same numbers give the same bytes: no time, no version, no random identifier.
//! The colours are those of Okabe and Ito, *Color Universal Design* (2008), told apart by readers with any colour
//! vision; the named curve styles differ also in dash or width, so a grey print is still legible.
//!
//! In labels and captions `x_{c}` sets a subscript and `10^{-3}` a superscript; all else stands as it is written.
//!
//! # Accuracy
//! Curves are thinned to the points the eye can see: no line moves by more than 0.3 units (0.08 mm; a quarter from the
//! columns of a function of the abscissa, 0.05 from straightening), or 1.1 where even so a curve would keep more than
//! 20 000 points. A number that cannot be drawn (not finite; not positive on a
//! logarithmic axis) is an error, never a silent gap.
//!
//! ```
//! use lindstedt::export::figure::{Curve, CurveStyle, Panel, figure};
//!
//! let wave: Vec<(f64, f64)> = (0..200).map(|i| f64::from(i) * 0.05).map(|t| (t, t.cos())).collect();
//! let panel = Panel {
//!     title: "Linear oscillator",
//!     x_label: "time t (units of 1/ω)",
//!     y_label: "displacement x (rad)",
//!     curves: vec![Curve { label: "cos t", points: &wave, style: CurveStyle::FORMULA }],
//!     ..Panel::default()
//! };
//! let svg = figure(&[panel], "Free vibration.")?;
//! assert!(svg.starts_with("<svg") && svg.contains("cos t"));
//! # Ok::<(), lindstedt::export::figure::FigureError>(())
//! ```

use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

/// The colours of Okabe and Ito (2008), and a grey for what is not data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// `#000000`
    Black,
    /// `#E69F00`
    Orange,
    /// `#56B4E9`
    SkyBlue,
    /// `#009E73`
    BluishGreen,
    /// `#F0E442`; too light for thin lines on white.
    Yellow,
    /// `#0072B2`
    Blue,
    /// `#D55E00`
    Vermillion,
    /// `#CC79A7`
    ReddishPurple,
    /// `#8C8C8C`
    Grey,
}

/// How the points of a curve are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// An unbroken line.
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// A dash and a dot in turn.
    DashDotted,
    /// No line: a disc at every point.
    Points,
}

/// Colour, dash and width of a curve. The named ones are told apart by hue, by dash and by width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveStyle {
    /// Colour of the line or discs.
    pub colour: Colour,
    /// Line pattern, or discs.
    pub stroke: Stroke,
    /// Line width or disc diameter, in page units of 1/96 inch.
    pub width: f64,
}

impl CurveStyle {
    /// The truth by Runge-Kutta: broad, light and solid, to be drawn first so that formulas lie over it.
    pub const RUNGE_KUTTA: Self = Self {
        colour: Colour::SkyBlue,
        stroke: Stroke::Solid,
        width: 4.5,
    };
    /// A closed form: thin, dark and dashed.
    pub const FORMULA: Self = Self {
        colour: Colour::Vermillion,
        stroke: Stroke::Dashed,
        width: 2.0,
    };
    /// A second closed form beside the first: thin, black and dotted.
    pub const SECOND_FORMULA: Self = Self {
        colour: Colour::Black,
        stroke: Stroke::Dotted,
        width: 1.4,
    };
    /// A difference or an error: thin and solid.
    pub const DIFFERENCE: Self = Self {
        colour: Colour::Blue,
        stroke: Stroke::Solid,
        width: 1.6,
    };
}

/// One line of a panel.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Words for the legend; curves of several panels with the same label and style share one entry, an empty label
    /// has none.
    pub label: &'a str,
    /// Points (abscissa, ordinate) in the units of the axes, in the order in which they are joined; at least two,
    /// or one for [`Stroke::Points`].
    pub points: &'a [(f64, f64)],
    /// Colour, dash and width.
    pub style: CurveStyle,
}

/// Which axis a [`Guide`] stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The guide is vertical, at values of the abscissa.
    X,
    /// The guide is horizontal, at values of the ordinate.
    Y,
}

/// A thin grey line across a panel (`from == to`), or a shaded region with a line at each end that is finite:
/// `from: 0.323, to: f64::INFINITY` is a barrier that fills everything beyond 0.323.
#[derive(Clone, Copy, Debug)]
pub struct Guide<'a> {
    /// The axis the two values are read on.
    pub axis: Axis,
    /// Lower end, in the units of that axis; may be minus infinity.
    pub from: f64,
    /// Upper end; may be infinity.
    pub to: f64,
    /// Words for the legend, or empty.
    pub label: &'a str,
}

/// How an axis is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equal distances.
    #[default]
    Linear,
    /// Equal ratios are equal distances; every value must be positive.
    Logarithmic,
}

/// One pair of axes with what is drawn on it.
#[derive(Clone, Debug, Default)]
pub struct Panel<'a> {
    /// Short title, set after the letter of the panel.
    pub title: &'a str,
    /// Quantity, symbol and, last and in parentheses, unit of the abscissa: `time t (units of 1/ω)`. Numbers far from
    /// one are divided by a power of ten that is named there: `(10⁻⁷ units of 1/ω)`.
    pub x_label: &'a str,
    /// The same for the ordinate.
    pub y_label: &'a str,
    /// Division of the abscissa.
    pub x_scale: Scale,
    /// Division of the ordinate.
    pub y_scale: Scale,
    /// The curves, drawn in this order, the last on top; at least one.
    pub curves: Vec<Curve<'a>>,
    /// Lines and shaded regions behind the curves.
    pub guides: Vec<Guide<'a>>,
    /// Takes the whole width of the page instead of half.
    pub wide: bool,
}

/// Why there is no figure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FigureError {
    /// No panel was given.
    #[error("a figure needs at least one panel")]
    NoPanel,
    /// A panel without a curve.
    #[error("panel \"{panel}\" has no curve: leave the panel out or give it data")]
    NoCurve {
        /// Title of the panel.
        panel: String,
    },
    /// A curve with too few points to be seen.
    #[error("curve \"{curve}\" in panel \"{panel}\" has {count} point(s); a line needs 2, discs need 1")]
    TooFewPoints {
        /// Title of the panel.
        panel: String,
        /// Label of the curve.
        curve: String,
        /// How many points there are.
        count: usize,
    },
    /// A line width that no pen has.
    #[error("curve \"{curve}\" in panel \"{panel}\" has line width {width}; it must be positive and finite")]
    BadWidth {
        /// Title of the panel.
        panel: String,
        /// Label of the curve.
        curve: String,
        /// The width.
        width: f64,
    },
    /// A coordinate that is infinite or not a number.
    #[error(
        "point {index} of curve \"{curve}\" in panel \"{panel}\" is ({x}, {y}), which is not finite: \
         end the curve before it, or give the two sides as two curves with one label"
    )]
    NotFinite {
        /// Title of the panel.
        panel: String,
        /// Label of the curve.
        curve: String,
        /// Position of the point in the curve, from 0.
        index: usize,
        /// Its abscissa.
        x: f64,
        /// Its ordinate.
        y: f64,
    },
    /// A coordinate that has no logarithm.
    #[error(
        "point {index} of curve \"{curve}\" in panel \"{panel}\" is ({x}, {y}), and {axis} is logarithmic: \
         take absolute values and leave zeros out"
    )]
    NotPositive {
        /// Title of the panel.
        panel: String,
        /// Label of the curve.
        curve: String,
        /// Position of the point in the curve, from 0.
        index: usize,
        /// Its abscissa.
        x: f64,
        /// Its ordinate.
        y: f64,
        /// `the abscissa` or `the ordinate`.
        axis: &'static str,
    },
    /// A guide at no number, or reversed, or not positive on a logarithmic axis.
    #[error("guide \"{guide}\" in panel \"{panel}\" runs from {from} to {to}, which is no place on its axis")]
    BadGuide {
        /// Title of the panel.
        panel: String,
        /// Label of the guide.
        guide: String,
        /// Its lower end.
        from: f64,
        /// Its upper end.
        to: f64,
    },
    /// The span of the values overflows double precision.
    #[error("{axis} of panel \"{panel}\" runs from {low:e} to {high:e}, too wide to draw: use a logarithmic axis")]
    TooWide {
        /// Title of the panel.
        panel: String,
        /// `the abscissa` or `the ordinate`.
        axis: &'static str,
        /// Smallest value.
        low: f64,
        /// Largest value.
        high: f64,
    },
    /// More strokes than a page can show.
    #[error(
        "curve \"{curve}\" in panel \"{panel}\" still has {count} visible points after thinning, more than 20000: \
         draw fewer periods"
    )]
    TooDense {
        /// Title of the panel.
        panel: String,
        /// Label of the curve.
        curve: String,
        /// Points left.
        count: usize,
    },
    /// Formula and truth were not sampled at the same times.
    #[error(
        "formula and truth must be sampled at the same times: they have {formula} and {truth} samples and part \
         at sample {index}"
    )]
    DifferentTimes {
        /// Number of samples of the formula.
        formula: usize,
        /// Number of samples of the truth.
        truth: usize,
        /// First sample whose times differ.
        index: usize,
    },
}

/// One motion of the impact oscillator: a column of the answer, or Runge-Kutta.
#[derive(Clone, Copy, Debug)]
pub struct ImpactMotion<'a> {
    /// Words for the legend: `closed form (paper)`, `closed form (energy)`, `Runge-Kutta`.
    pub label: &'a str,
    /// Colour, dash and width.
    pub style: CurveStyle,
    /// Samples (t, x, x'), t in units of 1/omega, x in rad, x' = dx/d(omega t).
    pub samples: &'a [(f64, f64, f64)],
    /// One contact: (time since touch in units of 1/omega, penetration x - x_c in rad); empty where the motion has
    /// none.
    pub contact: &'a [(f64, f64)],
}

/// What [`impact_figure`] draws.
#[derive(Clone, Copy, Debug)]
pub struct ImpactFigure<'a> {
    /// Barrier on the left, in rad: everything below it is shaded.
    pub left_barrier: Option<f64>,
    /// Barrier on the right, x_c in rad: everything above it is shaded.
    pub right_barrier: Option<f64>,
    /// The motions, drawn in this order: Runge-Kutta first, formulas over it.
    pub motions: &'a [ImpactMotion<'a>],
    /// Words below the figure, or empty.
    pub caption: &'a str,
}

/// The pendulum against its barrier: phase plane, displacement against time, and the contact enlarged. The third
/// panel is left out where no motion has a contact.
///
/// # Errors
/// As [`figure`].
pub fn impact_figure(data: &ImpactFigure) -> Result<String, FigureError> {
    let phase: Vec<Vec<(f64, f64)>> = data.motions.iter().map(|m| phase_points(m.samples)).collect();
    let time: Vec<Vec<(f64, f64)>> = data.motions.iter().map(|m| time_points(m.samples)).collect();
    let mut panels = vec![
        Panel {
            title: "Phase plane",
            x_label: "displacement x (rad)",
            y_label: "velocity x′ (dimensionless)",
            curves: curves_of(data.motions, &phase),
            guides: barriers(data, Axis::X),
            ..Panel::default()
        },
        Panel {
            title: "Motion in time",
            x_label: "time t (units of 1/ω)",
            y_label: "displacement x (rad)",
            curves: curves_of(data.motions, &time),
            guides: barriers(data, Axis::Y),
            ..Panel::default()
        },
    ];
    let contacts: Vec<Curve> = data
        .motions
        .iter()
        .filter(|m| !m.contact.is_empty())
        .map(|m| Curve {
            label: m.label,
            points: m.contact,
            style: m.style,
        })
        .collect();
    if !contacts.is_empty() {
        panels.push(Panel {
            title: "Contact, enlarged",
            x_label: "time since touch (units of 1/ω)",
            y_label: "penetration x − x_{c} (rad)",
            curves: contacts,
            wide: true,
            ..Panel::default()
        });
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
    /// Words below the figure, or empty.
    pub caption: &'a str,
}

/// A derived solution against Runge-Kutta over one true period: x(t), the difference x_formula - x_true, and the
/// phase plane.
///
/// # Errors
/// [`FigureError::DifferentTimes`] where the two were not sampled at the same times; otherwise as [`figure`].
pub fn motion_figure(data: &MotionFigure) -> Result<String, FigureError> {
    let (formula, truth) = (data.formula, data.truth);
    let same = formula.iter().zip(truth).take_while(|(f, t)| f.0 == t.0).count();
    if same < formula.len().max(truth.len()) {
        return Err(FigureError::DifferentTimes {
            formula: formula.len(),
            truth: truth.len(),
            index: same,
        });
    }
    let difference: Vec<(f64, f64)> = formula.iter().zip(truth).map(|(f, t)| (f.0, f.1 - t.1)).collect();
    let (formula_phase, truth_phase) = (phase_points(formula), phase_points(truth));
    let (formula_time, truth_time) = (time_points(formula), time_points(truth));

    let name = data.coordinate;
    let unit = |text: &str| {
        if text.is_empty() {
            String::new()
        } else {
            format!(" ({text})")
        }
    };
    let time_label = format!("time t{}", unit(data.time_unit));
    let displacement_label = format!("displacement {name}{}", unit(data.displacement_unit));
    let velocity_label = format!("velocity {name}′");
    let difference_label = format!("{name}_{{formula}} − {name}_{{true}}{}", unit(data.displacement_unit));
    let panels = [
        Panel {
            title: "Motion over one true period",
            x_label: &time_label,
            y_label: &displacement_label,
            curves: formula_over_truth(data.formula_label, &formula_time, &truth_time),
            wide: true,
            ..Panel::default()
        },
        Panel {
            title: "Difference",
            x_label: &time_label,
            y_label: &difference_label,
            curves: vec![Curve {
                label: "formula − truth",
                points: &difference,
                style: CurveStyle::DIFFERENCE,
            }],
            guides: vec![Guide {
                axis: Axis::Y,
                from: 0.0,
                to: 0.0,
                label: "",
            }],
            ..Panel::default()
        },
        Panel {
            title: "Phase plane",
            x_label: &displacement_label,
            y_label: &velocity_label,
            curves: formula_over_truth(data.formula_label, &formula_phase, &truth_phase),
            ..Panel::default()
        },
    ];
    figure(&panels, data.caption)
}

/// Width of the page in units of 1/96 inch: 190 mm.
const PAGE_WIDTH: f64 = 720.0;
/// White border of the page.
const MARGIN: f64 = 10.0;
/// White space between two panels.
const GAP: f64 = 16.0;
/// Height of a row of two panels, and of a wide panel.
const ROW_HEIGHT: f64 = 292.0;
const WIDE_ROW_HEIGHT: f64 = 250.0;
/// Space above the axes for letter and title, below for numbers and label, and to the right.
const ABOVE: f64 = 28.0;
const BELOW: f64 = 44.0;
const RIGHT: f64 = 10.0;
/// Font sizes: numbers on the axes, labels and legend, titles.
const SMALL: u32 = 11;
const NORMAL: u32 = 12;
const LARGE: u32 = 13;
/// Length of a line in the legend: long enough to show two periods of the longest dash.
const SAMPLE: f64 = 38.0;
/// Points of one curve beyond which the tolerance of thinning is doubled.
const MANY_POINTS: usize = 20_000;

/// Sets panels two abreast, lettered A, B, ..., with one legend above and the caption below. A panel that is `wide`,
/// or would stand alone in its row, takes the whole row.
///
/// Labels are shortened with an ellipsis where they are longer than their place; the caption is broken into lines.
///
/// # Errors
/// [`FigureError`], which names the panel and the curve.
pub fn figure(panels: &[Panel], caption: &str) -> Result<String, FigureError> {
    if panels.is_empty() {
        return Err(FigureError::NoPanel);
    }
    for panel in panels {
        check(panel)?;
    }
    let slots = arrange(panels);
    let ordinates = panels
        .iter()
        .zip(&slots)
        .map(|(panel, slot)| ordinate(panel, slot.height - ABOVE - BELOW))
        .collect::<Result<Vec<_>, _>>()?;
    // Axes one above the other start at the same place.
    let left_of = |column: usize| {
        let labels = ordinates.iter().zip(&slots).filter(|(_, slot)| slot.column == column);
        f64::from(NORMAL) + 15.0 + labels.map(|(axis, _)| axis.widest_label()).fold(0.0, f64::max)
    };
    let lefts = [left_of(0), left_of(1)];

    let mut page = Page { elements: Vec::new() };
    let top = legend(panels, &mut page);
    for (index, ((panel, slot), y)) in panels.iter().zip(&slots).zip(&ordinates).enumerate() {
        let left = slot.left + lefts[slot.column];
        let frame = Frame {
            label_left: slot.left + f64::from(NORMAL),
            left,
            top: top + slot.top + ABOVE,
            width: slot.left + slot.width - RIGHT - left,
            height: slot.height - ABOVE - BELOW,
        };
        draw(index, panel, &frame, y, &mut page)?;
    }
    let mut bottom = top + slots.last().map_or(0.0, |slot| slot.top + slot.height);
    for line in broken_into_lines(caption, PAGE_WIDTH - 2.0 * MARGIN - 8.0) {
        bottom += 17.0;
        page.text((MARGIN + 4.0, bottom), &line, NORMAL, TextAnchor::Start);
    }
    Ok(page.into_svg(bottom + MARGIN))
}

fn phase_points(samples: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    samples.iter().map(|&(_, x, velocity)| (x, velocity)).collect()
}

fn time_points(samples: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    samples.iter().map(|&(t, x, _)| (t, x)).collect()
}

/// The curves of one panel of [`impact_figure`]: every motion with its own points.
fn curves_of<'a>(motions: &[ImpactMotion<'a>], points: &'a [Vec<(f64, f64)>]) -> Vec<Curve<'a>> {
    motions
        .iter()
        .zip(points)
        .map(|(m, points)| Curve {
            label: m.label,
            points,
            style: m.style,
        })
        .collect()
}

/// The formula over the truth, as in two panels of [`motion_figure`].
fn formula_over_truth<'a>(label: &'a str, formula: &'a [(f64, f64)], truth: &'a [(f64, f64)]) -> Vec<Curve<'a>> {
    vec![
        Curve {
            label: "Runge-Kutta",
            points: truth,
            style: CurveStyle::RUNGE_KUTTA,
        },
        Curve {
            label,
            points: formula,
            style: CurveStyle::FORMULA,
        },
    ]
}

fn barriers(data: &ImpactFigure, axis: Axis) -> Vec<Guide<'static>> {
    let left = data.left_barrier.map(|at| Guide {
        axis,
        from: f64::NEG_INFINITY,
        to: at,
        label: "barrier",
    });
    let right = data.right_barrier.map(|at| Guide {
        axis,
        from: at,
        to: f64::INFINITY,
        label: "barrier",
    });
    left.into_iter().chain(right).collect()
}

// ---------------------------------------------------------------------------------------------------------------------
// What may be drawn

/// Refuses what cannot be drawn, so that everything below works with finite numbers.
fn check(panel: &Panel) -> Result<(), FigureError> {
    let name = || panel.title.to_string();
    if panel.curves.is_empty() {
        return Err(FigureError::NoCurve { panel: name() });
    }
    for curve in &panel.curves {
        let (count, label) = (curve.points.len(), || curve.label.to_string());
        if count < if curve.style.stroke == Stroke::Points { 1 } else { 2 } {
            return Err(FigureError::TooFewPoints {
                panel: name(),
                curve: label(),
                count,
            });
        }
        let width = curve.style.width;
        if !(width > 0.0 && width.is_finite()) {
            return Err(FigureError::BadWidth {
                panel: name(),
                curve: label(),
                width,
            });
        }
        for (index, &(x, y)) in curve.points.iter().enumerate() {
            if !(x.is_finite() && y.is_finite()) {
                return Err(FigureError::NotFinite {
                    panel: name(),
                    curve: label(),
                    index,
                    x,
                    y,
                });
            }
            let abscissa = panel.x_scale == Scale::Logarithmic && x <= 0.0;
            if abscissa || panel.y_scale == Scale::Logarithmic && y <= 0.0 {
                let axis = if abscissa { ABSCISSA } else { ORDINATE };
                return Err(FigureError::NotPositive {
                    panel: name(),
                    curve: label(),
                    index,
                    x,
                    y,
                    axis,
                });
            }
        }
    }
    for guide in &panel.guides {
        let scale = if guide.axis == Axis::X {
            panel.x_scale
        } else {
            panel.y_scale
        };
        // One end of a region may lie at infinity, but not both ends at the same one.
        let placed = guide.from <= guide.to && guide.from < f64::INFINITY && guide.to > f64::NEG_INFINITY;
        let lowest = [guide.from, guide.to]
            .into_iter()
            .filter(|end| end.is_finite())
            .fold(f64::INFINITY, f64::min);
        if !placed || scale == Scale::Logarithmic && lowest <= 0.0 {
            let (from, to) = (guide.from, guide.to);
            return Err(FigureError::BadGuide {
                panel: name(),
                guide: guide.label.to_string(),
                from,
                to,
            });
        }
    }
    Ok(())
}

const ABSCISSA: &str = "the abscissa";
const ORDINATE: &str = "the ordinate";

// ---------------------------------------------------------------------------------------------------------------------
// Where the panels stand

/// The place of a panel below the legend.
struct Slot {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    column: usize,
}

fn arrange(panels: &[Panel]) -> Vec<Slot> {
    let full = PAGE_WIDTH - 2.0 * MARGIN;
    let half = (full - GAP) / 2.0;
    let (mut slots, mut top) = (Vec::with_capacity(panels.len()), 0.0);
    let mut rest = panels;
    while let Some((first, others)) = rest.split_first() {
        match others.split_first() {
            Some((second, after)) if !first.wide && !second.wide => {
                let right = MARGIN + half + GAP;
                slots.push(Slot {
                    left: MARGIN,
                    top,
                    width: half,
                    height: ROW_HEIGHT,
                    column: 0,
                });
                slots.push(Slot {
                    left: right,
                    top,
                    width: half,
                    height: ROW_HEIGHT,
                    column: 1,
                });
                top += ROW_HEIGHT;
                rest = after;
            }
            _ => {
                slots.push(Slot {
                    left: MARGIN,
                    top,
                    width: full,
                    height: WIDE_ROW_HEIGHT,
                    column: 0,
                });
                top += WIDE_ROW_HEIGHT;
                rest = others;
            }
        }
    }
    slots
}

/// The rectangle of the axes, on the page.
struct Frame {
    /// Where the label of the ordinate stands.
    label_left: f64,
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Frame {
    fn x(&self, axis: &Ruler, value: f64) -> f64 {
        self.left + self.width * axis.fraction(value)
    }

    fn y(&self, axis: &Ruler, value: f64) -> f64 {
        self.top + self.height * (1.0 - axis.fraction(value))
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Axes

/// A divided axis. Positions are values on a linear axis and decimal logarithms on a logarithmic one.
struct Ruler {
    scale: Scale,
    low: f64,
    high: f64,
    /// Positions of the long ticks, with the number that is written there.
    ticks: Vec<(f64, String)>,
    /// Positions of the short ticks.
    short_ticks: Vec<f64>,
    /// The written numbers times 10 to this power are the values.
    exponent: i32,
}

impl Ruler {
    fn position(&self, value: f64) -> f64 {
        if self.scale == Scale::Logarithmic {
            value.log10()
        } else {
            value
        }
    }

    /// How far along the axis a value lies: 0 at the lower end, 1 at the upper.
    fn fraction(&self, value: f64) -> f64 {
        self.fraction_of_position(self.position(value))
    }

    fn fraction_of_position(&self, position: f64) -> f64 {
        ((position - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }

    fn widest_label(&self) -> f64 {
        self.ticks
            .iter()
            .map(|(_, label)| width_of(label, SMALL))
            .fold(0.0, f64::max)
    }

    /// The label with the power of ten written into its unit.
    fn label(&self, text: &str) -> String {
        if self.exponent == 0 {
            return text.to_string();
        }
        let power = power_of_ten(self.exponent);
        match text.rsplit_once('(') {
            Some((quantity, "dimensionless)")) => format!("{quantity}({power})"),
            Some((quantity, unit)) if unit.ends_with(')') => format!("{quantity}({power} {unit}"),
            _ => format!("{text} ({power})"),
        }
    }
}

fn ordinate(panel: &Panel, length: f64) -> Result<Ruler, FigureError> {
    let (low, high) = range(panel, Axis::Y);
    ruler(low, high, panel.y_scale, 0.05, |_| length / 24.0).ok_or_else(|| FigureError::TooWide {
        panel: panel.title.to_string(),
        axis: ORDINATE,
        low,
        high,
    })
}

fn abscissa(panel: &Panel, length: f64) -> Result<Ruler, FigureError> {
    let (low, high) = range(panel, Axis::X);
    // Functions of time fill the width; a phase portrait, or discs alone, keep clear of the frame.
    let mut lines = panel
        .curves
        .iter()
        .filter(|curve| curve.style.stroke != Stroke::Points)
        .peekable();
    let fills = lines.peek().is_some() && lines.all(|curve| is_ascending(curve.points));
    let padding = if fills { 0.0 } else { 0.05 };
    let capacity = |widest: f64| length / (widest + 22.0);
    ruler(low, high, panel.x_scale, padding, capacity).ok_or_else(|| FigureError::TooWide {
        panel: panel.title.to_string(),
        axis: ABSCISSA,
        low,
        high,
    })
}

/// Smallest and largest value of the curves and the finite ends of the guides, and room to see that a region without
/// end, such as a hard barrier, is one.
fn range(panel: &Panel, axis: Axis) -> (f64, f64) {
    let along = |point: &(f64, f64)| if axis == Axis::X { point.0 } else { point.1 };
    let values = panel.curves.iter().flat_map(|curve| curve.points.iter().map(along));
    let guides = || panel.guides.iter().filter(|guide| guide.axis == axis);
    let ends = guides()
        .flat_map(|guide| [guide.from, guide.to])
        .filter(|end| end.is_finite());
    let (mut low, mut high) = extremes(values.chain(ends));
    let scale = if axis == Axis::X { panel.x_scale } else { panel.y_scale };
    if scale == Scale::Linear {
        let room = 0.1 * (high - low);
        for guide in guides() {
            if guide.from == f64::NEG_INFINITY && guide.to.is_finite() {
                low = low.min(guide.to - room);
            }
            if guide.to == f64::INFINITY && guide.from.is_finite() {
                high = high.max(guide.from + room);
            }
        }
    }
    (low, high)
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Divides an axis from `low` to `high`, widened by `padding` of its length at each end. `capacity` tells how many
/// labels have room when the widest of them is that wide. `None` where the length overflows.
fn ruler(low: f64, high: f64, scale: Scale, padding: f64, capacity: impl Fn(f64) -> f64) -> Option<Ruler> {
    match scale {
        Scale::Linear => linear_ruler(low, high, padding, capacity),
        Scale::Logarithmic => Some(logarithmic_ruler(low.log10(), high.log10(), padding, capacity)),
    }
}

fn linear_ruler(low: f64, high: f64, padding: f64, capacity: impl Fn(f64) -> f64) -> Option<Ruler> {
    let largest = low.abs().max(high.abs());
    // A difference that double precision hardly resolves is drawn as a constant in the middle, not as its rounding.
    let (low, high) = if high - low > 1e-9 * largest && high - low > 1e-290 {
        let room = padding * (high - low);
        (low - room, high + room)
    } else {
        let half = if largest > 1e-280 { 0.05 * largest } else { 1.0 };
        (low - half, high + half)
    };
    // Beyond this the steps between ticks could overflow.
    let span = high - low;
    if span.is_nan() || span > 1e300 {
        return None;
    }
    // The finest division whose labels have room; two ticks there must be.
    let mut ruler = with_linear_ticks(low, high, 2);
    for count in 3..=10 {
        let candidate = with_linear_ticks(low, high, count);
        if ruler.ticks.len() >= 2 && candidate.ticks.len() as f64 > capacity(candidate.widest_label()) {
            break;
        }
        ruler = candidate;
    }
    Some(ruler)
}

/// Ticks at multiples of 1, 2 or 5 times a power of ten, about `count` of them.
fn with_linear_ticks(low: f64, high: f64, count: u32) -> Ruler {
    let raw = (high - low) / f64::from(count);
    let mut decade = raw.log10().floor() as i32;
    let (digit, parts) = match raw / 10f64.powi(decade) {
        d if d <= 1.0 => (1.0, 5.0),
        d if d <= 2.0 => (2.0, 4.0),
        d if d <= 5.0 => (5.0, 5.0),
        _ => {
            decade += 1;
            (1.0, 5.0)
        }
    };
    let step = digit * 10f64.powi(decade);
    // A hair of tolerance keeps the tick at an end that is itself a multiple of the step.
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let largest = (first * step).abs().max((last * step).abs());
    let exponent = if (1e-2..1e5).contains(&largest) || largest == 0.0 {
        0
    } else {
        largest.log10().floor() as i32
    };
    let decimals = usize::try_from(exponent - decade).unwrap_or(0);
    let multiples = |step: f64, first: f64, last: f64| {
        (0..=(last - first) as usize)
            .map(move |i| step * (first + i as f64))
            .collect::<Vec<f64>>()
    };
    let label = |value: f64| minus_sign(&format!("{:.decimals$}", value / 10f64.powi(exponent)));
    let ticks = multiples(step, first, last)
        .into_iter()
        .map(|value| (value, label(value + 0.0)))
        .collect();
    let short = step / parts;
    let short_ticks = multiples(short, (low / short).ceil(), (high / short).floor());
    Ruler {
        scale: Scale::Linear,
        low,
        high,
        ticks,
        short_ticks,
        exponent,
    }
}

/// Ticks at powers of ten, from one decade at least; short ticks at 2, ..., 9 where there are few decades.
fn logarithmic_ruler(low: f64, high: f64, padding: f64, capacity: impl Fn(f64) -> f64) -> Ruler {
    let room = padding * (high - low);
    let (mut low, mut high) = (low - room, high + room);
    if high.floor() - low.ceil() < 1.0 {
        (low, high) = (low.floor(), high.ceil().max(low.floor() + 1.0));
    }
    let (first, last) = (low.ceil() as i32, high.floor() as i32);
    let room = capacity(width_of("10^{−00}", SMALL)).max(2.0);
    let stride = (1..)
        .find(|stride| f64::from((last - first) / stride + 1) <= room)
        .unwrap_or(1);
    // Labels stand at multiples of the stride, so that zero, if present, is one of them, unless that leaves only one.
    let multiples: Vec<i32> = (first..=last).filter(|k| k % stride == 0).collect();
    let decades = if multiples.len() > 1 {
        multiples
    } else {
        (0..=(last - first) / stride).map(|i| first + i * stride).collect()
    };
    let ticks = decades.into_iter().map(|k| (f64::from(k), power_of_ten(k))).collect();
    let short_ticks = if stride > 1 {
        (first..=last).map(f64::from).collect()
    } else {
        (first - 1..=last)
            .flat_map(|k| (2..10).map(move |digit| f64::from(k) + f64::from(digit).log10()))
            .filter(|position| (low..=high).contains(position))
            .collect()
    };
    Ruler {
        scale: Scale::Logarithmic,
        low,
        high,
        ticks,
        short_ticks,
        exponent: 0,
    }
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_string(),
        1 => "10".to_string(),
        _ => format!("10^{{{}}}", minus_sign(&exponent.to_string())),
    }
}

/// A number with the minus sign of print in place of the hyphen.
fn minus_sign(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

// ---------------------------------------------------------------------------------------------------------------------
// Drawing

fn draw(index: usize, panel: &Panel, frame: &Frame, y: &Ruler, page: &mut Page) -> Result<(), FigureError> {
    let x = &abscissa(panel, frame.width)?;
    for guide in &panel.guides {
        draw_guide(guide, frame, x, y, page);
    }
    for curve in &panel.curves {
        draw_curve(panel, curve, frame, x, y, page)?;
    }
    draw_axes(panel, frame, x, y, page);
    let letter = panel_letter(index);
    page.bold_text((frame.left, frame.top - 9.0), &letter, LARGE);
    let indent = width_of(&letter, LARGE) + 12.0;
    let title = shortened(panel.title, NORMAL, frame.width - indent);
    page.text(
        (frame.left + indent, frame.top - 9.0),
        &title,
        NORMAL,
        TextAnchor::Start,
    );
    Ok(())
}

/// A, B, ..., Z, then 27, 28, ...
fn panel_letter(index: usize) -> String {
    match u8::try_from(index) {
        Ok(small @ 0..26) => char::from(b'A' + small).to_string(),
        _ => (index + 1).to_string(),
    }
}

fn draw_guide(guide: &Guide, frame: &Frame, x: &Ruler, y: &Ruler, page: &mut Page) {
    let (right, bottom) = (frame.left + frame.width, frame.top + frame.height);
    let place = |value: f64, unbounded: f64| match guide.axis {
        _ if value.is_infinite() => unbounded,
        Axis::X => frame.x(x, value),
        Axis::Y => frame.y(y, value),
    };
    match guide.axis {
        Axis::X => {
            let (from, to) = (place(guide.from, frame.left), place(guide.to, right));
            page.rectangle(from, frame.top, to - from, frame.height, SHADE);
        }
        Axis::Y => {
            let (from, to) = (place(guide.from, bottom), place(guide.to, frame.top));
            page.rectangle(frame.left, to, frame.width, from - to, SHADE);
        }
    }
    for end in [guide.from, guide.to].into_iter().filter(|end| end.is_finite()) {
        let at = place(end, 0.0);
        match guide.axis {
            Axis::X => page.line((at, frame.top), (at, bottom), GUIDE_LINE, 1.0),
            Axis::Y => page.line((frame.left, at), (right, at), GUIDE_LINE, 1.0),
        }
    }
}

const SHADE: &str = "#e6e6e6";
const GUIDE_LINE: &str = "#8c8c8c";

fn draw_curve(
    panel: &Panel,
    curve: &Curve,
    frame: &Frame,
    x: &Ruler,
    y: &Ruler,
    page: &mut Page,
) -> Result<(), FigureError> {
    let points: Vec<(f64, f64)> = curve
        .points
        .iter()
        .map(|point| (frame.x(x, point.0), frame.y(y, point.1)))
        .collect();
    let shown = if curve.style.stroke == Stroke::Points {
        distinct_discs(&points)
    } else {
        thinned(&points)
    };
    if shown.len() > MANY_POINTS {
        let (panel, curve) = (panel.title.to_string(), curve.label.to_string());
        return Err(FigureError::TooDense {
            panel,
            curve,
            count: shown.len(),
        });
    }
    page.curve(&shown, &curve.style);
    Ok(())
}

fn draw_axes(panel: &Panel, frame: &Frame, x: &Ruler, y: &Ruler, page: &mut Page) {
    let (right, bottom) = (frame.left + frame.width, frame.top + frame.height);
    let long = |axis: &Ruler| axis.ticks.iter().map(|tick| (tick.0, 5.0)).collect::<Vec<_>>();
    let short = |axis: &Ruler| {
        axis.short_ticks
            .iter()
            .map(|&position| (position, 2.5))
            .collect::<Vec<_>>()
    };
    for (position, length) in [short(x), long(x)].concat() {
        let at = frame.left + frame.width * x.fraction_of_position(position);
        page.line((at, bottom), (at, bottom - length), "#000000", 0.8);
        page.line((at, frame.top), (at, frame.top + length), "#000000", 0.8);
    }
    for (position, length) in [short(y), long(y)].concat() {
        let at = bottom - frame.height * y.fraction_of_position(position);
        page.line((frame.left, at), (frame.left + length, at), "#000000", 0.8);
        page.line((right, at), (right - length, at), "#000000", 0.8);
    }
    page.outline(frame);
    for (position, label) in &x.ticks {
        let at = frame.left + frame.width * x.fraction_of_position(*position);
        // A long number at the very end is moved back on to the page.
        let inside = at.min(PAGE_WIDTH - 2.0 - width_of(label, SMALL) / 2.0);
        page.text((inside, bottom + 16.0), label, SMALL, TextAnchor::Middle);
    }
    for (position, label) in &y.ticks {
        let at = bottom - frame.height * y.fraction_of_position(*position);
        page.text((frame.left - 6.0, at + 4.0), label, SMALL, TextAnchor::End);
    }
    let x_label = shortened(&x.label(panel.x_label), NORMAL, frame.width);
    page.text(
        (frame.left + frame.width / 2.0, bottom + 34.0),
        &x_label,
        NORMAL,
        TextAnchor::Middle,
    );
    let y_label = shortened(&y.label(panel.y_label), NORMAL, frame.height + ABOVE);
    page.upright_text((frame.label_left, frame.top + frame.height / 2.0), &y_label, NORMAL);
}

/// What stands before the words in the legend.
#[derive(Clone, Copy, PartialEq)]
enum Sample {
    Curve(CurveStyle),
    GuideLine,
    Region,
}

/// Draws the legend, its entries in as many centred rows as they need, and returns where the panels may begin.
fn legend(panels: &[Panel], page: &mut Page) -> f64 {
    let mut entries: Vec<(&str, Sample)> = Vec::new();
    let curves = panels.iter().flat_map(|panel| &panel.curves);
    let guides = panels.iter().flat_map(|panel| &panel.guides);
    let of_guide = |guide: &Guide| {
        if guide.from == guide.to {
            Sample::GuideLine
        } else {
            Sample::Region
        }
    };
    let of_curves = curves.map(|curve| (curve.label, Sample::Curve(curve.style)));
    for entry in of_curves.chain(guides.map(|guide| (guide.label, of_guide(guide)))) {
        if !entry.0.is_empty() && !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    let full = PAGE_WIDTH - 2.0 * MARGIN;
    let (between, after_sample) = (24.0, 8.0);
    let mut rows: Vec<Vec<(String, Sample, f64)>> = Vec::new();
    let mut used = 0.0;
    for (label, sample) in entries {
        let label = shortened(label, NORMAL, full - SAMPLE - after_sample);
        let width = SAMPLE + after_sample + width_of(&label, NORMAL);
        match rows.last_mut() {
            Some(row) if used + between + width <= full => {
                row.push((label, sample, width));
                used += between + width;
            }
            _ => {
                rows.push(vec![(label, sample, width)]);
                used = width;
            }
        }
    }
    let mut at = MARGIN + 8.0;
    for row in rows {
        let total = row.iter().map(|entry| entry.2 + between).sum::<f64>() - between;
        let mut left = (PAGE_WIDTH - total) / 2.0;
        for (label, sample, width) in row {
            let right = left + SAMPLE;
            match sample {
                Sample::Curve(style) if style.stroke == Stroke::Points => {
                    page.curve(&[((left + right) / 2.0, at)], &style);
                }
                Sample::Curve(style) => page.curve(&[(left, at), (right, at)], &style),
                Sample::GuideLine => page.line((left, at), (right, at), GUIDE_LINE, 1.0),
                Sample::Region => {
                    page.rectangle(left, at - 6.0, SAMPLE, 12.0, SHADE);
                    page.line((left, at - 6.0), (left, at + 6.0), GUIDE_LINE, 1.0);
                }
            }
            page.text((right + after_sample, at + 4.0), &label, NORMAL, TextAnchor::Start);
            left += width + between;
        }
        at += 19.0;
    }
    at - 4.0
}

// ---------------------------------------------------------------------------------------------------------------------
// Thinning, on the page

fn is_ascending(points: &[(f64, f64)]) -> bool {
    points.windows(2).all(|pair| pair[0].0 <= pair[1].0)
}

/// The points that are needed to draw a line without a visible change.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let columns = if is_ascending(points) {
        column_extremes(points, 0.25)
    } else {
        points.to_vec()
    };
    let mut tolerance = 0.05;
    loop {
        let kept = within_sleeve(&columns, tolerance);
        if kept.len() <= MANY_POINTS || tolerance > 0.5 {
            return kept;
        }
        tolerance *= 2.0;
    }
}

/// Of a function of the abscissa, the first, lowest, highest and last point of every column of that width: a dense
/// oscillation keeps its envelope.
fn column_extremes(points: &[(f64, f64)], width: f64) -> Vec<(f64, f64)> {
    let column = |point: &(f64, f64)| (point.0 / width).floor();
    let mut kept = Vec::new();
    for group in points.chunk_by(|one, other| column(one) == column(other)) {
        let indices = 0..group.len();
        let lowest = indices
            .clone()
            .min_by(|&i, &j| group[i].1.total_cmp(&group[j].1))
            .unwrap_or(0);
        let highest = indices.max_by(|&i, &j| group[i].1.total_cmp(&group[j].1)).unwrap_or(0);
        let mut chosen = [0, lowest, highest, group.len() - 1];
        chosen.sort_unstable();
        let mut previous = None;
        for index in chosen {
            if previous != Some(index) {
                kept.push(group[index]);
            }
            previous = Some(index);
        }
    }
    kept
}

/// Leaves out every point that lies within `tolerance` of the line which replaces it (the sleeve of Zhao and
/// Saalfeld, 1997): from each kept point a cone of directions is narrowed by the points that follow, until one falls
/// outside it or turns back.
fn within_sleeve(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    let Some((&first, rest)) = points.split_first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let (mut anchor, mut last) = (first, first);
    // Direction of the first point outside the tolerance, the cone about it, and the largest distance so far.
    let mut cone: Option<(f64, f64, f64)> = None;
    let mut reach = 0.0;
    for &point in rest {
        let mut from_anchor = (point.0 - anchor.0, point.1 - anchor.1);
        let mut distance = from_anchor.0.hypot(from_anchor.1);
        if let Some((axis, low, high)) = cone {
            let turn = turn_between(axis, from_anchor.1.atan2(from_anchor.0));
            if distance >= reach && (low..=high).contains(&turn) {
                let half = (tolerance / distance).asin();
                cone = Some((axis, low.max(turn - half), high.min(turn + half)));
                reach = distance;
                last = point;
                continue;
            }
            kept.push(last);
            anchor = last;
            from_anchor = (point.0 - anchor.0, point.1 - anchor.1);
            distance = from_anchor.0.hypot(from_anchor.1);
            cone = None;
        }
        if distance > tolerance {
            let half = (tolerance / distance).asin();
            cone = Some((from_anchor.1.atan2(from_anchor.0), -half, half));
        }
        reach = distance;
        last = point;
    }
    kept.push(last);
    kept
}

/// The angle from one direction to another, between -pi and pi.
fn turn_between(from: f64, to: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let turn = to - from;
    if turn > PI {
        turn - TAU
    } else if turn < -PI {
        turn + TAU
    } else {
        turn
    }
}

/// Discs that do not lie within a tenth of a unit of the disc before them.
fn distinct_discs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut kept = points.to_vec();
    kept.dedup_by(|point, before| (point.0 - before.0).hypot(point.1 - before.1) < 0.1);
    kept
}

// ---------------------------------------------------------------------------------------------------------------------
// Words

/// Width of a text in page units, from the widths of Helvetica in thousandths of its size and a tenth more for
/// broader fonts; the marks of sub- and superscripts take none.
fn width_of(text: &str, size: u32) -> f64 {
    let plain = text.replace("_{", "").replace("^{", "").replace('}', "");
    let thousandths = |c: char| match c {
        'i' | 'j' | 'l' | '\'' | '|' | '′' => 222.0,
        ' ' | '.' | ',' | ':' | ';' | '!' | 'f' | 't' | 'I' | '/' | '\\' | '[' | ']' => 278.0,
        '(' | ')' | '-' | 'r' | '`' | '"' => 350.0,
        'c' | 'k' | 's' | 'v' | 'x' | 'y' | 'z' | 'J' => 500.0,
        'm' | 'M' => 833.0,
        'w' | 'C' | 'D' | 'H' | 'N' | 'R' | 'U' => 722.0,
        'G' | 'O' | 'Q' => 778.0,
        'W' | '%' | '@' => 1000.0,
        'A'..='Z' => 667.0,
        '\u{300}'..='\u{36f}' => 0.0,
        '\u{2e80}'.. => 1000.0,
        _ => 584.0,
    };
    plain.chars().map(thousandths).sum::<f64>() * 1.1e-3 * f64::from(size)
}

/// The text, or its beginning and an ellipsis where it is wider than its place.
fn shortened(text: &str, size: u32, width: f64) -> String {
    if width_of(text, size) <= width {
        return text.to_string();
    }
    let mut kept: Vec<char> = text.chars().take(200).collect();
    while !kept.is_empty() && width_of(&String::from_iter(&kept), size) > width - f64::from(size) {
        kept.pop();
    }
    String::from_iter(kept) + "…"
}

fn broken_into_lines(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width_of(&format!("{line} {word}"), NORMAL) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(shortened(word, NORMAL, width)),
        }
    }
    lines
}

// ---------------------------------------------------------------------------------------------------------------------
// The page: the only place that knows the drawing library

/// Strokes and words collected in drawing order.
struct Page {
    elements: Vec<Primitive>,
}

impl Page {
    fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64) {
        self.path(
            format!("M{} {}L{} {}", short(from.0), short(from.1), short(to.0), short(to.1)),
            colour,
            width,
            None,
        );
    }

    fn path(&mut self, d: String, colour: &str, stroke_width: f64, dashes: Option<&str>) {
        let stroke_dasharray = dashes.map(str::to_string);
        let stroke = Color::from(colour);
        let path = PathData {
            d,
            fill: None,
            stroke,
            stroke_width,
            opacity: None,
            stroke_dasharray,
        };
        self.elements.push(Primitive::Path(Box::new(path)));
    }

    fn curve(&mut self, points: &[(f64, f64)], style: &CurveStyle) {
        let colour = hexadecimal(style.colour);
        if style.stroke == Stroke::Points {
            for &(cx, cy) in points {
                let (r, fill) = (style.width / 2.0, Color::from(colour));
                let (fill_opacity, stroke, stroke_width) = (None, None, None);
                self.elements.push(Primitive::Circle {
                    cx,
                    cy,
                    r,
                    fill,
                    fill_opacity,
                    stroke,
                    stroke_width,
                });
            }
            return;
        }
        let mut d = String::with_capacity(14 * points.len());
        for (index, &(x, y)) in points.iter().enumerate() {
            d.push(if index == 0 { 'M' } else { 'L' });
            d.push_str(&short(x));
            d.push(' ');
            d.push_str(&short(y));
        }
        let dashes = match style.stroke {
            Stroke::Solid | Stroke::Points => None,
            Stroke::Dashed => Some("7 4"),
            Stroke::Dotted => Some("1.5 3"),
            Stroke::DashDotted => Some("9 3 2 3"),
        };
        // The default joint, a spike, would reach far beyond a turning point at a hard barrier.
        let (transform, title, extra_attrs) = (None, None, Some("stroke-linejoin=\"round\"".to_string()));
        self.elements.push(Primitive::GroupStart {
            transform,
            title,
            extra_attrs,
        });
        self.path(d, colour, style.width, dashes);
        self.elements.push(Primitive::GroupEnd);
    }

    fn outline(&mut self, frame: &Frame) {
        let (left, top) = (short(frame.left), short(frame.top));
        let (right, bottom) = (short(frame.left + frame.width), short(frame.top + frame.height));
        self.path(format!("M{left} {top}H{right}V{bottom}H{left}Z"), "#000000", 1.0, None);
    }

    fn rectangle(&mut self, x: f64, y: f64, width: f64, height: f64, colour: &str) {
        if width > 0.0 && height > 0.0 {
            let (fill, stroke, stroke_width, opacity) = (Color::from(colour), None, None, None);
            self.elements.push(Primitive::Rect {
                x,
                y,
                width,
                height,
                fill,
                stroke,
                stroke_width,
                opacity,
            });
        }
    }

    fn text(&mut self, at: (f64, f64), text: &str, size: u32, anchor: TextAnchor) {
        self.any_text(at, text, size, anchor, None, false);
    }

    fn bold_text(&mut self, at: (f64, f64), text: &str, size: u32) {
        self.any_text(at, text, size, TextAnchor::Start, None, true);
    }

    /// Text that reads from bottom to top, centred on the ordinate.
    fn upright_text(&mut self, at: (f64, f64), text: &str, size: u32) {
        self.any_text(at, text, size, TextAnchor::Middle, Some(-90.0), false);
    }

    fn any_text(&mut self, at: (f64, f64), text: &str, size: u32, anchor: TextAnchor, rotate: Option<f64>, bold: bool) {
        if !text.is_empty() {
            let content = printable(text);
            // Half units are written without rounding noise.
            let (x, y) = ((2.0 * at.0).round() / 2.0, (2.0 * at.1).round() / 2.0);
            let color = None;
            self.elements.push(Primitive::Text {
                x,
                y,
                content,
                size,
                anchor,
                rotate,
                bold,
                color,
            });
        }
    }

    fn into_svg(self, height: f64) -> String {
        let mut scene = Scene::new(PAGE_WIDTH, height.ceil());
        scene.font_family = Some("Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif".to_string());
        scene.text_color = Some("#000000".to_string());
        scene.elements = self.elements;
        let drawn = SvgBackend::new().with_pretty(true).render_scene(&scene);
        // The comment names a version of the drawing library, and would make the same figure differ between builds.
        let drawn: String = drawn
            .lines()
            .filter(|l| !l.trim_start().starts_with("<!--"))
            .map(|l| format!("{l}\n"))
            .collect();
        // Without a view box the figure could not be scaled in a page.
        let size = format!("width=\"{PAGE_WIDTH}\" height=\"{}\"", height.ceil());
        let boxed = format!("{size} viewBox=\"0 0 {PAGE_WIDTH} {}\"", height.ceil());
        with_raised_and_lowered(&drawn.replacen(&size, &boxed, 1)).replace(DOLLAR, "$")
    }
}

/// Stands for the dollar sign, which the drawing library takes for the start of a formula.
const DOLLAR: char = '\u{E024}';

/// The text without what XML forbids or the drawing library would read as its own.
fn printable(text: &str) -> String {
    let replace = |c: char| match c {
        '$' => DOLLAR,
        '\t' | '\n' | '\r' => ' ',
        c if c.is_control() || c == DOLLAR || matches!(c, '\u{FFFE}' | '\u{FFFF}') => '\u{FFFD}',
        c => c,
    };
    text.chars().map(replace).collect()
}

/// A coordinate to a hundredth of a unit, in as few characters as that takes.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_string()
    } else {
        text.to_string()
    }
}

fn hexadecimal(colour: Colour) -> &'static str {
    match colour {
        Colour::Black => "#000000",
        Colour::Orange => "#e69f00",
        Colour::SkyBlue => "#56b4e9",
        Colour::BluishGreen => "#009e73",
        Colour::Yellow => "#f0e442",
        Colour::Blue => "#0072b2",
        Colour::Vermillion => "#d55e00",
        Colour::ReddishPurple => "#cc79a7",
        Colour::Grey => "#8c8c8c",
    }
}

/// Sets `_{...}` lower and `^{...}` higher, in smaller type; the text after it returns to the line.
fn with_raised_and_lowered(svg: &str) -> String {
    let mut result = String::with_capacity(svg.len());
    for line in svg.lines() {
        if line.trim_start().starts_with("<text") {
            set_line(line, &mut result)
        } else {
            result.push_str(line)
        }
        result.push('\n');
    }
    result
}

fn set_line(line: &str, result: &mut String) {
    let mut rest = line;
    // How far the text stands below the line, in page units; the next piece moves back by it.
    let mut shift = 0;
    while let Some((start, mark)) = ["_{", "^{"]
        .iter()
        .filter_map(|mark| Some((rest.find(mark)?, *mark)))
        .min()
    {
        let Some(length) = rest[start + 2..].find('}') else {
            break;
        };
        move_to(&rest[..start], shift, result);
        shift = if mark == "_{" { 3 } else { -5 };
        let inner = &rest[start + 2..start + 2 + length];
        result.push_str(&format!("<tspan dy=\"{shift}\" font-size=\"8.5\">{inner}</tspan>"));
        rest = &rest[start + 3 + length..];
    }
    match rest.strip_suffix("</text>") {
        Some(text) => {
            move_to(text, shift, result);
            result.push_str("</text>");
        }
        None => result.push_str(rest),
    }
}

/// Writes text that follows a raised or lowered piece, back on the line.
fn move_to(text: &str, shift: i32, result: &mut String) {
    match (shift, text) {
        (0, _) | (_, "") => result.push_str(text),
        // A space at the start of a piece is dropped by some readers of SVG, a shift by its width by none.
        _ => match text.strip_prefix(' ') {
            Some(rest) => result.push_str(&format!("<tspan dx=\"3.3\" dy=\"{}\">{rest}</tspan>", -shift)),
            None => result.push_str(&format!("<tspan dy=\"{}\">{text}</tspan>", -shift)),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RAMP: [(f64, f64); 2] = [(0.0, 0.0), (1.0, 1.0)];

    fn panel<'a>(curves: Vec<Curve<'a>>) -> Panel<'a> {
        Panel {
            title: "title",
            x_label: "time t (s)",
            y_label: "displacement x (rad)",
            curves,
            ..Panel::default()
        }
    }

    fn line<'a>(label: &'a str, points: &'a [(f64, f64)]) -> Curve<'a> {
        Curve {
            label,
            points,
            style: CurveStyle::FORMULA,
        }
    }

    /// A swing against a barrier at 0.5: cos(t) until it is reached, reflected there.
    fn swing(samples: usize) -> Vec<(f64, f64, f64)> {
        let half = std::f64::consts::TAU / 3.0;
        let time = |i: usize| 2.0 * half * i as f64 / (samples - 1) as f64;
        let at = |t: f64| {
            if t < half {
                (t, -t.cos(), t.sin())
            } else {
                (t, -(2.0 * half - t).cos(), -(2.0 * half - t).sin())
            }
        };
        (0..samples).map(|i| at(time(i))).collect()
    }

    /// The words of a figure, in the order of drawing, without their marks.
    fn words(svg: &str) -> Vec<String> {
        let texts = svg.lines().filter(|line| line.trim_start().starts_with("<text"));
        texts
            .map(|line| {
                let mut word = String::new();
                let mut inside = false;
                for c in line.trim().chars() {
                    match c {
                        '<' => inside = true,
                        '>' => inside = false,
                        c if !inside => word.push(c),
                        _ => {}
                    }
                }
                word
            })
            .collect()
    }

    /// Corners of the n-th frame of axes: left, top, right, bottom.
    fn frame(svg: &str, n: usize) -> [f64; 4] {
        let outlines = svg
            .lines()
            .filter_map(|line| line.trim().strip_prefix("<path d=\"M")?.split_once("Z\""));
        let numbers = outlines.map(|(outline, _)| {
            let parts = outline
                .split([' ', 'H', 'V'])
                .map(|part| part.parse().unwrap_or(f64::NAN));
            parts.collect::<Vec<f64>>()
        });
        let corners = numbers.filter(|numbers| numbers.len() == 5).nth(n).unwrap_or_default();
        [corners[0], corners[1], corners[2], corners[3]]
    }

    /// Points of the lines drawn in that colour and with more than two points, or two if `short`.
    fn drawn(svg: &str, colour: &str) -> Vec<Vec<(f64, f64)>> {
        let paths = svg
            .lines()
            .filter(|line| line.contains(&format!("stroke=\"{colour}\"")));
        paths
            .filter_map(|line| line.trim().strip_prefix("<path d=\"M")?.split_once('"'))
            .map(|(d, _)| {
                let pairs = d.split('L').filter_map(|pair| pair.split_once(' '));
                pairs
                    .map(|(x, y)| (x.parse().unwrap_or(f64::NAN), y.parse().unwrap_or(f64::NAN)))
                    .collect()
            })
            .collect()
    }

    #[test]
    fn impact_figure_shows_every_motion_in_every_panel() {
        let samples = swing(301);
        let contact = [(0.0, 0.0), (1e-7, 2e-8), (2e-7, 0.0)];
        let motion = |label, style| ImpactMotion {
            label,
            style,
            samples: &samples,
            contact: &contact,
        };
        let motions = [
            motion("Runge-Kutta", CurveStyle::RUNGE_KUTTA),
            motion("closed form (paper)", CurveStyle::FORMULA),
            motion("closed form (energy)", CurveStyle::SECOND_FORMULA),
        ];
        let data = ImpactFigure {
            left_barrier: None,
            right_barrier: Some(0.5),
            motions: &motions,
            caption: "A caption that stands below.",
        };
        let svg = impact_figure(&data).unwrap();
        let words = words(&svg);
        for expected in [
            "Runge-Kutta",
            "closed form (paper)",
            "closed form (energy)",
            "barrier",
            "A",
            "B",
            "C",
            "displacement x (rad)",
            "velocity x′ (dimensionless)",
            "time t (units of 1/ω)",
            "time since touch (10−7units of 1/ω)",
            "penetration x − xc(10−8rad)",
            "A caption that stands below.",
        ] {
            assert!(
                words.iter().any(|word| word == expected),
                "{expected} is not in {words:?}"
            );
        }
        assert_eq!(
            words.iter().filter(|word| *word == "Runge-Kutta").count(),
            1,
            "one legend entry for three panels"
        );
        // The legend and three panels.
        for style in [CurveStyle::RUNGE_KUTTA, CurveStyle::FORMULA] {
            assert_eq!(drawn(&svg, hexadecimal(style.colour)).len(), 4);
        }
        assert_eq!(svg.matches(SHADE).count(), 3, "barrier in the legend and in two panels");

        let both = ImpactFigure {
            left_barrier: Some(-1.2),
            ..data
        };
        assert_eq!(impact_figure(&both).unwrap().matches(SHADE).count(), 5);
        let free = ImpactMotion {
            contact: &[],
            ..motions[0]
        };
        let svg = impact_figure(&ImpactFigure {
            motions: &[free],
            ..data
        })
        .unwrap();
        assert!(!svg.contains("Contact"));
    }

    #[test]
    fn motion_figure_draws_the_difference_it_was_given() {
        let truth = swing(200);
        let formula: Vec<_> = truth.iter().map(|&(t, x, v)| (t, x + 0.25 * t, v)).collect();
        let data = MotionFigure {
            coordinate: "u",
            displacement_unit: "rad",
            time_unit: "",
            formula_label: "Lindstedt-Poincaré, order 4",
            formula: &formula,
            truth: &truth,
            caption: "",
        };
        let svg = motion_figure(&data).unwrap();
        let words = words(&svg);
        for expected in ["time t", "displacement u (rad)", "velocity u′", "uformula− utrue(rad)"] {
            assert!(
                words.iter().any(|word| word == expected),
                "{expected} is not in {words:?}"
            );
        }
        // The difference 0.25 t is straight, from corner to corner but for the padding: thinning leaves its two ends.
        let [left, top, right, bottom] = frame(&svg, 1);
        let difference = &drawn(&svg, "#0072b2")[1];
        let padding = (bottom - top) * 0.05 / 1.1;
        assert_eq!(difference.len(), 2);
        for (point, corner) in difference
            .iter()
            .zip([(left, bottom - padding), (right, top + padding)])
        {
            assert!(
                (point.0 - corner.0).hypot(point.1 - corner.1) < 0.05,
                "{point:?} is not at {corner:?}"
            );
        }

        let shifted: Vec<_> = truth
            .iter()
            .map(|&(t, x, v)| (t + if t > 1.0 { 1e-9 } else { 0.0 }, x, v))
            .collect();
        let index = truth.iter().position(|sample| sample.0 > 1.0).unwrap();
        let refused = motion_figure(&MotionFigure {
            truth: &shifted,
            ..data
        });
        assert_eq!(
            refused,
            Err(FigureError::DifferentTimes {
                formula: 200,
                truth: 200,
                index
            })
        );
        let refused = motion_figure(&MotionFigure {
            truth: &truth[..7],
            ..data
        });
        assert_eq!(
            refused,
            Err(FigureError::DifferentTimes {
                formula: 200,
                truth: 7,
                index: 7
            })
        );
    }

    #[test]
    fn points_stand_where_the_axes_say() {
        let points = [(0.0, 0.0), (0.5, 1.0), (1.0, 0.25)];
        let svg = figure(&[panel(vec![line("curve", &points)])], "").unwrap();
        let [left, top, right, bottom] = frame(&svg, 0);
        for (at, (x, y)) in drawn(&svg, "#d55e00")[1].iter().zip(points) {
            assert!((at.0 - (left + x * (right - left))).abs() < 0.02);
            assert!((at.1 - (bottom - (y + 0.05) / 1.1 * (bottom - top))).abs() < 0.02);
        }
    }

    #[test]
    fn logarithmic_axis_is_true_far_below_rounding() {
        let points = [(0.0, 1e-18), (1.0, 1e-16), (2.0, 1e-12), (3.0, 1e-2)];
        let error = Panel {
            y_scale: Scale::Logarithmic,
            ..panel(vec![line("error", &points)])
        };
        let svg = figure(&[error], "").unwrap();
        let heights: Vec<f64> = drawn(&svg, "#d55e00")[1].iter().map(|point| point.1).collect();
        let decade = (heights[0] - heights[1]) / 2.0;
        assert!(decade > 5.0);
        assert!((heights[1] - heights[2] - 4.0 * decade).abs() < 0.05);
        assert!((heights[2] - heights[3] - 10.0 * decade).abs() < 0.1);
        assert!(
            words(&svg).iter().any(|word| word == "10−12" || word == "10−15"),
            "{:?}",
            words(&svg)
        );
    }

    #[test]
    fn same_numbers_give_the_same_bytes_and_nothing_else_is_in_them() {
        let panels = [panel(vec![line("curve", &RAMP)]), panel(vec![line("curve", &RAMP)])];
        let first = figure(&panels, "words").unwrap();
        assert_eq!(figure(&panels, "words").unwrap(), first);
        assert!(!first.contains("<!--") && !first.to_lowercase().contains("kuva"));
        assert!(first.starts_with("<svg ") && first.ends_with("</svg>\n"));
        assert!(first.contains("viewBox=\"0 0 720 "));
    }

    #[test]
    fn labels_cannot_break_the_document() {
        let label = "a<b> & \"c\" 'd' $5 and $6 \u{0}\u{1b}[1m\n<!-- no -->";
        let labelled = Panel {
            title: label,
            x_label: label,
            y_label: label,
            guides: vec![Guide {
                axis: Axis::X,
                from: 0.5,
                to: 0.5,
                label,
            }],
            ..panel(vec![line(label, &RAMP)])
        };
        let svg = figure(&[labelled], label).unwrap();
        assert!(svg.contains("a&lt;b&gt; &amp; &quot;c&quot; &apos;d&apos; $5 and $6 \u{fffd}\u{fffd}[1m &lt;!-- no"));
        let names = [
            "svg", "/svg", "rect", "path", "g", "/g", "text", "/text", "tspan", "/tspan",
        ];
        for tag in svg.split('<').skip(1) {
            let name = tag.split([' ', '>']).next().unwrap_or_default();
            assert!(names.contains(&name), "<{name}> comes from a label");
        }
        assert!(svg.chars().all(|c| !c.is_control() || c == '\n'));
    }

    #[test]
    fn long_labels_are_shortened_and_long_captions_broken() {
        let long = "word ".repeat(100);
        let labelled = Panel {
            title: &long,
            x_label: &long,
            y_label: &long,
            ..panel(vec![line(&long, &RAMP)])
        };
        let svg = figure(&[labelled], &long).unwrap();
        let words = words(&svg);
        assert_eq!(words.iter().filter(|word| word.ends_with('…')).count(), 4);
        assert!(words.iter().all(|word| width_of(word, NORMAL) < PAGE_WIDTH));
        let caption: usize = words
            .iter()
            .filter(|w| !w.ends_with('…'))
            .map(|w| w.matches("word").count())
            .sum();
        assert_eq!(caption, 100);
    }

    #[test]
    fn raised_and_lowered_pieces_return_to_the_line() {
        let rows = [
            ("plain", "plain"),
            ("x_{c}", "x<tspan dy=\"3\" font-size=\"8.5\">c</tspan>"),
            (
                "x_{c} b",
                "x<tspan dy=\"3\" font-size=\"8.5\">c</tspan><tspan dx=\"3.3\" dy=\"-3\">b</tspan>",
            ),
            (
                "10^{2}/y",
                "10<tspan dy=\"-5\" font-size=\"8.5\">2</tspan><tspan dy=\"5\">/y</tspan>",
            ),
            ("a_{b", "a_{b"),
        ];
        for (text, set) in rows {
            let mut result = String::new();
            set_line(&format!("<text>{text}</text>"), &mut result);
            assert_eq!(result, format!("<text>{set}</text>"));
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_by_name() {
        let (panel_name, curve) = ("title".to_string(), "curve".to_string());
        let nan = [(0.0, 1.0), (1.0, f64::NAN)];
        let infinite = [(0.0, 1.0), (1.0, 2.0), (f64::INFINITY, 3.0)];
        let zero = [(1.0, 1.0), (2.0, 0.0)];
        let wide = [(0.0, -1.7e308), (1.0, 1.7e308)];
        let drawn = |points| figure(&[panel(vec![line("curve", points)])], "");

        assert_eq!(figure(&[], ""), Err(FigureError::NoPanel));
        let no_curve = FigureError::NoCurve {
            panel: panel_name.clone(),
        };
        assert_eq!(figure(&[panel(Vec::new())], ""), Err(no_curve));
        for count in [0, 1] {
            let (panel, curve) = (panel_name.clone(), curve.clone());
            assert_eq!(
                drawn(&RAMP[..count]),
                Err(FigureError::TooFewPoints { panel, curve, count })
            );
        }
        let message = drawn(&nan).unwrap_err().to_string();
        assert!(
            message.starts_with("point 1 of curve \"curve\" in panel \"title\" is (1, NaN)"),
            "{message}"
        );
        assert!(matches!(drawn(&infinite), Err(FigureError::NotFinite { index: 2, .. })));
        assert!(matches!(drawn(&wide), Err(FigureError::TooWide { axis: ORDINATE, .. })));

        let logarithmic = Panel {
            y_scale: Scale::Logarithmic,
            ..panel(vec![line("curve", &zero)])
        };
        let refused = figure(&[logarithmic], "");
        assert!(matches!(
            refused,
            Err(FigureError::NotPositive {
                index: 1,
                axis: ORDINATE,
                ..
            })
        ));

        for (from, to) in [(f64::NAN, 1.0), (1.0, 0.0), (f64::INFINITY, f64::INFINITY)] {
            let guided = Panel {
                guides: vec![Guide {
                    axis: Axis::X,
                    from,
                    to,
                    label: "barrier",
                }],
                ..panel(vec![line("curve", &RAMP)])
            };
            assert!(
                matches!(figure(&[guided], ""), Err(FigureError::BadGuide { .. })),
                "{from} {to}"
            );
        }
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let style = CurveStyle {
                width,
                ..CurveStyle::FORMULA
            };
            let styled = Curve {
                style,
                ..line("curve", &RAMP)
            };
            assert!(
                matches!(figure(&[panel(vec![styled])], ""), Err(FigureError::BadWidth { .. })),
                "{width}"
            );
        }
        // A walk that jumps across the whole panel at every step cannot be thinned, only refused.
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8)
        };
        let noise: Vec<(f64, f64)> = (0..100_000).map(|_| (random(), random())).collect();
        assert!(matches!(drawn(&noise), Err(FigureError::TooDense { .. })));
    }

    #[test]
    fn a_million_points_make_a_small_figure_with_the_same_envelope() {
        let wave: Vec<(f64, f64)> = (0..1_000_000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| (t, t.sin()))
            .collect();
        let svg = figure(&[panel(vec![line("wave", &wave)])], "").unwrap();
        assert!(svg.len() < 400_000, "{} bytes", svg.len());
        let [_, top, _, bottom] = frame(&svg, 0);
        let padding = (bottom - top) * 0.05 / 1.1;
        let (highest, lowest) = extremes(drawn(&svg, "#d55e00")[1].iter().map(|point| point.1));
        assert!((highest - top - padding).abs() < 0.02 && (bottom - padding - lowest).abs() < 0.02);
    }

    /// Distance of a point from the nearest piece of a polyline.
    fn distance(point: (f64, f64), polyline: &[(f64, f64)]) -> f64 {
        let pieces = polyline.windows(2).map(|ends| {
            let (along, to) = (
                (ends[1].0 - ends[0].0, ends[1].1 - ends[0].1),
                (point.0 - ends[0].0, point.1 - ends[0].1),
            );
            let length = along.0 * along.0 + along.1 * along.1;
            let t = if length > 0.0 {
                ((along.0 * to.0 + along.1 * to.1) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (to.0 - t * along.0).hypot(to.1 - t * along.1)
        });
        pieces.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_circle_keeps_as_many_points_as_its_tolerance_needs() {
        let circle: Vec<(f64, f64)> = (0..=10_000)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 1e4)
            .map(|angle| (100.0 * angle.cos(), 100.0 * angle.sin()))
            .collect();
        let kept = within_sleeve(&circle, 0.05);
        // A chord whose sagitta is the tolerance spans 2 acos(1 - 0.05/100) = 0.0632: 99 of them. The sleeve, which
        // must also pass through the points it keeps, needs at most twice as many.
        assert!((90..=200).contains(&kept.len()), "{}", kept.len());
        assert!(circle.iter().all(|&point| distance(point, &kept) <= 0.05 + 1e-9));
        assert_eq!((kept.first(), kept.last()), (circle.first(), circle.last()));
    }

    proptest! {
        #[test]
        fn thinning_keeps_every_point_within_the_tolerance(
            steps in prop::collection::vec((-3.0..3.0_f64, -3.0..3.0_f64, 1_usize..6), 1..60)
        ) {
            let mut points = vec![(0.0, 0.0)];
            for (dx, dy, repeats) in steps {
                for _ in 0..repeats {
                    let (x, y) = points[points.len() - 1];
                    points.push((x + 0.3 * dx, y + 0.3 * dy));
                }
            }
            let kept = within_sleeve(&points, 0.5);
            for &point in &points {
                prop_assert!(distance(point, &kept) <= 0.5 + 1e-9 || kept.len() < 2);
            }
        }

        #[test]
        fn every_label_says_where_its_tick_stands(
            centre in -1.0..1.0_f64, half in 1e-6..1.0_f64, power in -250..250_i32, length in 60.0..700.0_f64
        ) {
            let scale = 10f64.powi(power);
            let (low, high) = ((centre - half) * scale, (centre + half) * scale);
            let axis = ruler(low, high, Scale::Linear, 0.0, |widest| length / (widest + 22.0)).unwrap();
            prop_assert!((2..=12).contains(&axis.ticks.len()), "{} ticks", axis.ticks.len());
            prop_assert!(axis.short_ticks.len() <= 60);
            let span = axis.high - axis.low;
            for (position, label) in &axis.ticks {
                let number: f64 = label.replace('\u{2212}', "-").parse().unwrap();
                prop_assert!((number * 10f64.powi(axis.exponent) - position).abs() < 1e-6 * span, "{label}");
                prop_assert!(*position >= low - 1e-6 * span && *position <= high + 1e-6 * span);
                prop_assert_ne!(label.as_str(), "\u{2212}0");
            }
            let labels: std::collections::BTreeSet<_> = axis.ticks.iter().map(|tick| &tick.1).collect();
            prop_assert_eq!(labels.len(), axis.ticks.len());
        }

        #[test]
        fn logarithmic_ticks_are_powers_of_ten_in_range(
            low in -320.0..308.0_f64, span in 0.0..300.0_f64, room in 2.0..9.0
        ) {
            let (low, high) = (10f64.powf(low), 10f64.powf((low + span).min(308.0)));
            let axis = ruler(low, high, Scale::Logarithmic, 0.05, |_| room).unwrap();
            prop_assert!((2..=9).contains(&axis.ticks.len()), "{} ticks", axis.ticks.len());
            for (position, label) in &axis.ticks {
                prop_assert!(*position >= axis.low && *position <= axis.high && position.fract() == 0.0);
                prop_assert_eq!(label, &power_of_ten(*position as i32));
            }
            prop_assert!(axis.fraction(low) >= 0.0 && axis.fraction(low) <= axis.fraction(high));
        }

        #[test]
        fn any_numbers_give_a_figure_or_a_refusal(
            points in prop::collection::vec((any::<f64>(), any::<f64>()), 0..6),
            x_log: bool,
            y_log: bool,
            to in any::<f64>(),
        ) {
            let scale = |log| if log { Scale::Logarithmic } else { Scale::Linear };
            let wild = Panel {
                x_scale: scale(x_log),
                y_scale: scale(y_log),
                guides: vec![Guide { axis: Axis::Y, from: f64::NEG_INFINITY, to, label: "guide" }],
                ..panel(vec![line("curve", &points)])
            };
            if let Ok(svg) = figure(&[wild.clone(), wild], "caption") {
                prop_assert!(!svg.contains("NaN") && !svg.contains("inf"));
            }
        }
    }

    #[test]
    fn constants_and_roundings_are_drawn_flat() {
        for value in [0.0, 1.0, -2.5e-300, 3e200] {
            let flat = [(0.0, value), (1.0, value * (1.0 + 2.0 * f64::EPSILON))];
            let svg = figure(&[panel(vec![line("flat", &flat)])], "").unwrap();
            let [_, top, _, bottom] = frame(&svg, 0);
            for point in &drawn(&svg, "#d55e00")[1] {
                assert!((point.1 - (top + bottom) / 2.0).abs() < 0.02, "{value}: {point:?}");
            }
        }
    }
}

//! One panel on its axes: which points are drawn, the range and power of ten of each axis, the
//! library's lines.

use std::collections::BTreeSet;
use std::sync::Arc;

use kuva::prelude::{Layout, LinePlot, LineStyle, Plot, ScatterPlot, TickFormat};

use super::{
    Curve, CurveStyle, FigureError, Guide, MOST_DOTS, MOST_POINTS, POINTS, Panel, Scale, printable,
};

/// The library's lines and axes for one panel that is one or two columns wide; refuses what has no
/// place on them.
pub(super) fn drawn(panel: &Panel, columns: usize) -> Result<(Vec<Plot>, Layout), FigureError> {
    let within = |thing: String| format!("{thing} in panel \"{}\"", panel.title);
    if panel.curves.is_empty() {
        return Err(FigureError::Empty(within("the list of curves".to_owned())));
    }
    let (mut xs, mut ys, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for curve in &panel.curves {
        let points = placed(curve, panel)?;
        xs.extend(points.iter().map(|point| point.0));
        ys.extend(points.iter().map(|point| point.1));
        lines.push((curve.label, points, curve.style));
    }
    for guide in &panel.guides {
        let (at, label, list) = match *guide {
            Guide::X(at, label) => (panel.x_scale.place(at), label, &mut xs),
            Guide::Y(at, label) => (panel.y_scale.place(at), label, &mut ys),
        };
        if !at.is_finite() {
            return Err(FigureError::OffAxes(within(format!("guide \"{label}\""))));
        }
        list.push(at);
    }
    let (x_power, x_range) = extent(&xs, panel.x_scale);
    let (y_power, y_range) = extent(&ys, panel.y_scale);
    let (x_unit, y_unit) = (10f64.powi(x_power), 10f64.powi(y_power));
    let across = |y: f64| vec![(x_range.0, y / y_unit), (x_range.1, y / y_unit)];
    let upright = |x: f64| vec![(x / x_unit, y_range.0), (x / x_unit, y_range.1)];
    let guides = panel.guides.iter().map(|guide| match *guide {
        Guide::X(at, label) => plot(label, upright(panel.x_scale.place(at)), CurveStyle::GUIDE),
        Guide::Y(at, label) => plot(label, across(panel.y_scale.place(at)), CurveStyle::GUIDE),
    });
    let scaled = |points: Vec<(f64, f64)>| {
        points.into_iter().map(|(x, y)| (x / x_unit, y / y_unit)).collect()
    };
    let curves = lines.into_iter();
    let curves = curves.map(|(label, points, style)| plot(label, scaled(points), style));
    let lines = guides.chain(curves).collect();
    Ok((lines, axes(panel, (x_power, x_range), (y_power, y_range), columns)))
}

impl Scale {
    /// Where a value lies on an axis. A logarithmic axis is drawn as a linear one of exponents,
    /// because the library's own ends at 1e-10.
    fn place(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.log10(),
        }
    }
}

/// The points of a curve on the axes of its panel, no more than can be told apart.
fn placed(
    Curve { label, points, style }: &Curve,
    panel: &Panel,
) -> Result<Vec<(f64, f64)>, FigureError> {
    let within = |thing: String| format!("{thing} in panel \"{}\"", panel.title);
    let place = |&(x, y): &(f64, f64)| (panel.x_scale.place(x), panel.y_scale.place(y));
    let off = |point: &&(f64, f64)| {
        let (x, y) = place(point);
        !point.0.is_finite() || !point.1.is_finite() || x.is_nan() || y.is_nan()
    };
    if let Some(point) = points.iter().find(off) {
        return Err(FigureError::OffAxes(within(format!("point {point:?} of \"{label}\""))));
    }
    let points = points.iter().map(place);
    let points: Vec<(f64, f64)> = points.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    let (points, enough) = match style.1 == POINTS {
        true => {
            let every = points.len().div_ceil(MOST_DOTS).max(1);
            (points.into_iter().step_by(every).collect(), 1)
        }
        false => (thinned(&points), 2),
    };
    if points.len() < enough {
        return Err(FigureError::TooFewPoints(within(format!("curve \"{label}\""))));
    }
    Ok(points)
}

/// A curve of the library's, or dots.
fn plot(
    label: &str,
    points: Vec<(f64, f64)>,
    CurveStyle(colour, dashes, width): CurveStyle,
) -> Plot {
    let words = Some(printable(label)).filter(|label| !label.is_empty());
    if dashes == POINTS {
        let points = ScatterPlot::new().with_data(points).with_color(colour).with_size(width);
        return Plot::Scatter(match words {
            None => points,
            Some(words) => points.with_legend(words),
        });
    }
    let line = LinePlot::new().with_data(points).with_color(colour);
    let mut line = line.with_stroke_width(width);
    line.legend_label = words;
    Plot::Line(line.with_line_style(LineStyle::Custom(dashes.to_owned())))
}

/// The power of ten that an axis is in, and its range in units of it.
type Extent = (i32, (f64, f64));

/// The axes of a panel.
fn axes(
    panel: &Panel,
    (x_power, x_range): Extent,
    (y_power, y_range): Extent,
    columns: usize,
) -> Layout {
    let mut layout = Layout::new(x_range, y_range)
        .with_title(printable(panel.title))
        .with_x_label(axis_label(panel.x_label, x_power))
        .with_y_label(axis_label(panel.y_label, y_power))
        .with_wrap(40 * columns)
        .with_y_label_wrap(32)
        .with_title_size(13)
        .with_label_size(12)
        .with_tick_size(11)
        .with_x_label_offset(0.0, -6.0)
        .with_box_axes()
        .with_tick_format(TickFormat::Custom(Arc::new(number)));
    layout.theme.grid_color = "#e8e8e8".to_owned();
    (layout.x_axis_min, layout.x_axis_max) = (Some(x_range.0), Some(x_range.1));
    (layout.y_axis_min, layout.y_axis_max) = (Some(y_range.0), Some(y_range.1));
    let exponents =
        || TickFormat::Custom(Arc::new(|exponent: f64| power_of_ten(exponent.round() as i32)));
    let decades = |range: (f64, f64)| Some(((range.1 - range.0) / 6.0).ceil());
    if panel.x_scale == Scale::Logarithmic {
        (layout.x_tick_step, layout.x_tick_format) = (decades(x_range), exponents());
    }
    if panel.y_scale == Scale::Logarithmic {
        (layout.y_tick_step, layout.y_tick_format) = (decades(y_range), exponents());
    }
    layout
}

/// The power of ten that makes the values readable, and their range in units of it (a constant in
/// the middle of one).
fn extent(values: &[f64], scale: Scale) -> Extent {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if scale == Scale::Logarithmic {
        return (0, (low.floor(), high.ceil().max(low.floor() + 1.0)));
    }
    let size = low.abs().max(high.abs());
    let readable = size == 0.0 || (0.01..1e4).contains(&size);
    let power = if readable { 0.0 } else { size.log10().floor() };
    let power = power.clamp(-300.0, 300.0) as i32;
    let [low, high, size] = [low, high, size].map(|value| value / 10f64.powi(power));
    let constant = high - low <= 1e-9 * size;
    let around = if constant { size.max(1e-9) } else { 0.05 * (high - low) };
    (power, (low - around, high + around))
}

fn axis_label(label: &str, power: i32) -> String {
    let factor = power_of_ten(power);
    printable(&match label.rsplit_once(" (") {
        _ if power == 0 => label.to_owned(),
        Some((quantity, unit)) => format!("{quantity} ({factor} {unit}"),
        None => format!("{label} ({factor})"),
    })
}

/// As short as nine decimals allow.
fn number(value: f64) -> String {
    let rounded = (value * 1e9).round() / 1e9;
    rounded.to_string().replace('-', "−")
}

pub(in crate::export) fn power_of_ten(exponent: i32) -> String {
    let digits: Vec<char> = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().collect();
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize]);
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// At most [`MOST_POINTS`] points and the last one: of each run the first, the lowest and the
/// highest.
pub(super) fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points.to_vec();
    }
    let by_height = |a: &usize, b: &usize| points[*a].1.total_cmp(&points[*b].1);
    let run = points.len().div_ceil(MOST_POINTS / 3);
    let starts = (0..points.len()).step_by(run);
    let runs = starts.map(|start| start..points.len().min(start + run));
    let kept = runs
        .flat_map(|run| [Some(run.start), run.clone().min_by(by_height), run.max_by(by_height)]);
    let kept: BTreeSet<usize> = kept.flatten().chain([points.len() - 1]).collect();
    kept.into_iter().map(|index| points[index]).collect()
}

//! A sweep of two parameters as a map.

use std::sync::Arc;

use kuva::prelude::{ColorMap, Heatmap, Layout, Plot, TickFormat};
use kuva::render::render::{Primitive, TextAnchor, render_multiple};

use super::figure::{SweepQuantity, axis_label};
use crate::decimal::{decimal, significant};
use crate::export::figure::{FigureError, power_of_ten, written};
use crate::impact::sweep::{Axis, Spacing};

/// The rows as the library draws them, upwards and to the right: a decreasing axis is reversed.
fn rising(grid: &[Vec<f64>], down_rises: bool, across_rises: bool) -> Vec<Vec<f64>> {
    let mut rows = grid.to_vec();
    if !down_rises {
        rows.reverse();
    }
    if !across_rises {
        rows.iter_mut().for_each(|row| row.reverse());
    }
    rows
}

/// The positions of the values of an axis on a map, at equal distances: the values themselves,
/// their exponents, or their indices.
struct Ruler {
    /// The positions of the first and the last value.
    ends: [f64; 2],
    /// The format of the tick labels.
    ticks: TickFormat,
    /// The distance of the labelled ticks; `None` leaves it to the library.
    step: Option<f64>,
}

impl Ruler {
    fn from_axis(axis: &Axis) -> Self {
        /// Possible steps between labelled exponents.
        const STEPS: [f64; 4] = [1.0, 0.5, 0.2, 0.1];
        let ends = axis.ends();
        let written = |value: f64| decimal((value * 1e12).round() / 1e12);
        match axis.spacing() {
            Spacing::Linear => {
                Self { ends, ticks: TickFormat::Custom(Arc::new(written)), step: None }
            }
            Spacing::Logarithmic => {
                let ends = ends.map(|end| end.abs().log10());
                let span = (ends[1] - ends[0]).abs();
                let ticks = |exponent: f64| match exponent.round() {
                    whole if (exponent - whole).abs() < 1e-9 => power_of_ten(whole as i32),
                    _ => significant(10_f64.powf(exponent), 3),
                };
                let small = STEPS.into_iter().find(|step| span >= 2.0 * step).unwrap_or(span / 3.0);
                let step = if span > 6.0 { (span / 6.0).ceil() } else { small };
                Self { ends, ticks: TickFormat::Custom(Arc::new(ticks)), step: Some(step) }
            }
            Spacing::List => {
                let values = axis.values().to_vec();
                let last = values.len() - 1;
                let ticks = move |place: f64| {
                    values.get(place.round() as usize).copied().map_or_else(String::new, decimal)
                };
                Self {
                    ends: [0.0, last as f64],
                    ticks: TickFormat::Custom(Arc::new(ticks)),
                    step: Some(last.div_ceil(12) as f64),
                }
            }
        }
    }

    fn rises(&self) -> bool {
        self.ends[1] >= self.ends[0]
    }

    /// The range from the edge of the first cell to that of the last, upwards.
    fn range(&self, count: usize) -> (f64, f64) {
        let [from, to] = self.ends;
        let half = 0.5 * (to - from) / (count.max(2) - 1) as f64;
        let (from, to) = (from - half, to + half);
        (from.min(to), from.max(to))
    }
}

/// The colour of a cell without a value.
const MISSING: &str = "#c8c8c8";

/// A cell for each motion, grey where its value is not a number, with the quantity and its unit at
/// the scale of colours.
pub(super) fn heat_map(
    grid: &[Vec<f64>],
    [down, across]: [&Axis; 2],
    quantity: &SweepQuantity,
    caption: &str,
) -> Result<String, FigureError> {
    let (down_ruler, across_ruler) = (Ruler::from_axis(down), Ruler::from_axis(across));
    let (x, y) = (across_ruler.range(across.values().len()), down_ruler.range(down.values().len()));
    let map = Heatmap::new()
        .with_data(rising(grid, down_ruler.rises(), across_ruler.rises()))
        .with_color_map(ColorMap::Custom(Arc::new(|part: f64| match part.is_finite() {
            true => ColorMap::Viridis.map(part),
            false => MISSING.to_owned(),
        })))
        .with_x_range(x.0, x.1)
        .with_y_range(y.0, y.1);
    let mut layout = Layout::new(x, y)
        .with_title(quantity.title)
        .with_x_label(axis_label(across))
        .with_y_label(axis_label(down))
        .with_x_tick_format(across_ruler.ticks)
        .with_y_tick_format(down_ruler.ticks);
    (layout.x_tick_step, layout.y_tick_step) = (across_ruler.step, down_ruler.step);
    (layout.x_axis_min, layout.x_axis_max) = (Some(x.0), Some(x.1));
    (layout.y_axis_min, layout.y_axis_max) = (Some(y.0), Some(y.1));
    layout.show_colorbar = true;
    let mut scene =
        render_multiple(vec![Plot::Heatmap(map)], layout.with_width(700.0).with_height(480.0));
    scene.width += 26.0;
    let (x, y) = (scene.width - 10.0, 0.5 * scene.height - 4.0);
    scene.add(Primitive::Text {
        x,
        y,
        content: quantity.label.to_owned(),
        size: 14,
        anchor: TextAnchor::Middle,
        rotate: Some(-90.0),
        bold: false,
        color: None,
    });
    // Room between the label of the axis and the caption.
    scene.height += 8.0;
    Ok(written(scene, caption))
}

#[cfg(test)]
mod tests {
    use super::super::figure::QUANTITIES;
    use super::*;

    /// The position of the one hot cell in the picture: left or right, above or below.
    #[test]
    fn cells_stand_at_their_values() {
        let axis = |from, to| Axis::linear("a", from, to, 2).expect("an axis");
        // The second value of the ordinate, the first of the abscissa.
        let grid = [vec![0.0, 0.0], vec![1.0, 0.0]];
        let place = |down: &Axis, across: &Axis| {
            let svg =
                heat_map(&grid, [down, across], &QUANTITIES[0], "Two by two.").expect("a map");
            let number = |cell: &str, key: &str| -> f64 {
                let rest = cell.split(&format!(" {key}=\"")).nth(1).expect("a coordinate");
                rest.split('"').next().and_then(|text| text.parse().ok()).expect("a number")
            };
            // The cells are the rectangles of the clipped group, set in by four spaces.
            let cells: Vec<&str> =
                svg.lines().filter(|line| line.starts_with("    <rect")).collect();
            assert_eq!(cells.len(), 4);
            let (hot, cold): (Vec<&str>, Vec<&str>) =
                cells.iter().partition(|cell| cell.contains("#fde725"));
            let side = |key| cold.iter().any(|cell| number(cell, key) > number(hot[0], key));
            (side("x"), side("y"))
        };
        let (left, above) = (true, true);
        assert_eq!(place(&axis(0.0, 1.0), &axis(0.0, 1.0)), (left, above));
        assert_eq!(place(&axis(1.0, 0.0), &axis(0.0, 1.0)), (left, !above));
        assert_eq!(place(&axis(0.0, 1.0), &axis(1.0, 0.0)), (!left, above));
    }
}
